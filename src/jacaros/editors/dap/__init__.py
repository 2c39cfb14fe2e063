"""The Debug Adapter Protocol over the debugger of a run."""
