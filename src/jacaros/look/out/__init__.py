"""What leaves the page: numeric series by name, plots for papers, and files for Foxglove."""
