# tests of the scene vocabulary
