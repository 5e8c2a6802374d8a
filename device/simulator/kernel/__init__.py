"""The compiled sample loop: profiles, servo and machine of all axes over one vector, until something happens."""
