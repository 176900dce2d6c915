# tests of feed: granrad_test(shelf/name libraries...)
