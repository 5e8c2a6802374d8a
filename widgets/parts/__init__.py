"""Small pieces shared by several windows."""
