# tests of raytrace: granrad_test(shelf/name libraries...)
granrad_test(analytic/view_factors granrad_raytrace)
granrad_test(physics/traced_bed granrad_raytrace)
granrad_test(physics/hard_enclosures granrad_raytrace)
