"""What the command line and web pages share: names of choices, values of flags, results."""
