"""Help pages and the way to them."""
