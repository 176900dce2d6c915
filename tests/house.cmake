# tests of the house itself
granrad_test(unit/layering granrad_flags)
