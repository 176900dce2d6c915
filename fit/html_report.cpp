#include "fit/html_report.h"
