"""Exploration: a robot maps a closed area with its distance sensors."""
