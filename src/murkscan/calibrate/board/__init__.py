"""The board that is photographed: its corners, where it is, and the stripe on it."""
