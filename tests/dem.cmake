# tests of dem: granrad_test(shelf/name libraries...)
granrad_test(physics/two_body granrad_dem)
