"""The tables of a case file by subject: their keys, what they mean and in which units; `cases.schema` joins them."""
