"""The version of the package: a module of its own, because the package itself reaches up to all layers."""

VERSION = "0.2.0"
