# tests of raytrace: granrad_test(shelf/name libraries...)
