// Exports nothing.
int nothingOfUse = 1;
