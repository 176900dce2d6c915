# tests of the house itself
granrad_test(unit/layering granrad_flags)
granrad_test(unit/shortest_numbers granrad_scene)
