"""The command line: commands, options, tables on the terminal and exit codes."""
