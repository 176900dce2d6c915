# tests of cli: granrad_test(shelf/name libraries...)
