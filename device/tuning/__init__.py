"""The mathematics of tuning: what an axis is, what the servo filter makes of it, which gains reach a target."""
