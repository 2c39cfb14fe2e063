"""The middleware port: one interface to topics, services and transforms, with several backends."""
