"""What vehicles record: MCAP, bags of ROS 1 and 2, a .tlog; pictures and navigation by topic."""
