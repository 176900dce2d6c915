# tests of fit: granrad_test(shelf/name libraries...)
