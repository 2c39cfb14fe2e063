"""A run inside a web browser, in Python compiled to WebAssembly: no threads, no sockets, and the browser has the loop."""
