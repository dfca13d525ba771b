"""The pages of a report: the overview, a page for each case, theory and glossary."""
