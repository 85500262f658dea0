"""Localisation by wheel odometry and scans."""
