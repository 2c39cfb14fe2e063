"""What can be said about a program that is read without errors, one kind of mistake per function."""
