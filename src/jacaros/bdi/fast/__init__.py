"""Faster versions of rules: each file replaces a part of `jacaros.bdi.rules` and may be left out."""
