# tests of lines: granrad_test(shelf/name libraries...)
granrad_test(unit/line_refusals granrad_raytrace)
granrad_test(analytic/line_factors granrad_raytrace)
granrad_test(physics/line_beds granrad_raytrace)
