"""From two solutions to a verdict: quantities, comparison, runner, figures, page and command line."""
