// Sets of directions and of columns, as parts of a turn look at them (algorithm: "Objects across parts").
#pragma once

#include <bitset>

#include "core/sight/turns.h"

namespace donex {

/// Columns wrap around.
using ColumnSet = std::bitset<SightPixels::kColumns>;

ColumnSet setOf(const Turns::Columns& columns);
/// Those with any band.
ColumnSet columnsIn(const Turns::Directions& directions);

/// Without those that are fewer than so many columns from one outside.
ColumnSet shrunk(const ColumnSet& columns, int times);

/// With gaps of twice as many columns filled, and less the column at each end.
Turns::Directions closed(const Turns::Directions& directions, int border);

/// Of a part that was cut by elevation: the outermost ones are shared with the parts above and below.
Turns::Bands withoutEnds(Turns::Bands bands);

}  // namespace donex
