#include "donex/core/detector.h"
