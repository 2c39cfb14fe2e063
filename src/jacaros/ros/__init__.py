"""The middleware port: one way to topics, services and transforms, with several backends behind it."""
