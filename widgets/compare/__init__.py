"""File, controller and EEPROM beside each other."""
