"""A robot behind a rosbridge server: `backend` joins the graph, `node` is the shared state, `link` the connection."""
