"""What the rod model costs: against the number of elements, part by part, and against its level and order."""
