# tests of the scene vocabulary
granrad_test(unit/toml_reader granrad_scene)
