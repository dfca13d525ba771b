"""Every night: all cases through Dask, their history, and what moved since."""
