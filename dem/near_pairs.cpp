#include "dem/near_pairs.h"
