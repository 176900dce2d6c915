# tests of coupling: granrad_test(shelf/name libraries...)
