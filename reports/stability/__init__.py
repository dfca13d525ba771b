"""Every method driven into its known failure, ours and the plain alternatives side by side."""
