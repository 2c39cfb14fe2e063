"""A robot behind a rosbridge server: `backend` joins, `node` is what all parts share, `link` is the connection."""
