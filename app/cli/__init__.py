"""The command line: everything the windows do with files and simulators, without a screen."""
