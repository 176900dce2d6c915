# tests of the scene vocabulary
granrad_test(unit/enclosure granrad_raytrace)
granrad_test(unit/frame granrad_scene)
granrad_test(unit/import granrad_scene)
granrad_test(unit/import_formats granrad_scene)
granrad_test(unit/near_pairs granrad_dem)
granrad_test(unit/scene granrad_scene)
granrad_test(unit/processors granrad_base)
granrad_test(unit/toml_reader granrad_scene)
