"""What the robot does between positions: its way, what it comes close to, and its speed."""
