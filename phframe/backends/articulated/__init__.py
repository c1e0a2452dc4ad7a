"""What physics engines that drive an arm by its joints share."""
