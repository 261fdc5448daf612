"""What each check has to show, made from the design alone."""
