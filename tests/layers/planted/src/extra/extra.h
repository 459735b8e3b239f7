// Not in the table.
