# tests of lines: granrad_test(shelf/name libraries...)
