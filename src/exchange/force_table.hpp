/// Force over displacement of one wall of a recorded run, as a table for other programs.
#pragma once

#include <optional>
#include <string>

#include "exchange/motion.hpp"
#include "history/table.hpp"

namespace monograin {

/// Table of displacement [m] and force [N] of a wall, a row for each instant of a motion, in the order of time. Column
/// `branch` numbers the pieces along which the displacement only grows or only falls, from 1: each of them is a curve
/// with one force for each displacement. The row of a reversal ends one branch and begins the next. Instants at which
/// the wall rests are left out. The header is that of the history.
/// @param contact_class  name of the class; none: the first one that moves
/// @throws std::invalid_argument that lists the classes if there is none of that name, or says that it does not move
[[nodiscard]] Table force_table(const Motion& motion, const std::optional<std::string>& contact_class);

}  // namespace monograin
