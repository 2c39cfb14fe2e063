"""What makes artifacts run; authors and hosts need none of it, only what `jacaros.artifacts` exports."""
