"""Project files: `.mas2j` and `.jcm`."""
