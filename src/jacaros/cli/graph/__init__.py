"""What ``jacaros ros`` finds out about a live graph, and what it writes from that."""
