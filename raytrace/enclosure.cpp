#include "raytrace/enclosure.h"
