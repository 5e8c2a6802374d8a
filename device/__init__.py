"""Everything between the program and a moving axis: line, controller, simulator."""
