# tests of raytrace: granrad_test(shelf/name libraries...)
granrad_test(analytic/view_factors granrad_raytrace)
