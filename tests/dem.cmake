# tests of dem: granrad_test(shelf/name libraries...)
