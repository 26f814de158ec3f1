"""Reports: the settings and results of a run as one HTML page that can be sent."""
