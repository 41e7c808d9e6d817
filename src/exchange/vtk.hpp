/// The deformed particle and its walls as files for ParaView and other readers of VTK's XML format.
#pragma once

#include <filesystem>
#include <string_view>

#include "exchange/motion.hpp"

namespace monograin {

/// Name of the file that lists the files of all instants; ParaView opens it.
inline constexpr std::string_view k_vtk_series = "run.pvd";

/// Writes particle and walls at instants of a motion, at most 200 of them evenly chosen: a file particle-NNNN.vtp and a
/// file walls-NNNN.vtp for each, and the list of all.
///
/// The particle is a sphere of the apparent radius, cut by the walls. Where a contact is lost, it stays cut at the
/// place where the wall last pressed. Its points have the displacement [m] from the undeformed sphere, the mean
/// pressure [Pa] within the contact radius of a contact that bears a force (NaN where the law has none; no such array
/// if it never has one), and the wall that cuts them, numbered from 1 in the order of the walls' file (0: free
/// surface). Walls are squares with the force [N] and the displacement [m] of each.
/// @param folder  exists
/// @throws std::runtime_error naming a file that cannot be written
void write_vtk(const Motion& motion, const std::filesystem::path& folder);

/// Writes the particle of a recorded run into a folder: all files or none. Files of an earlier particle there are
/// replaced; others stay.
/// @param target  made if it does not exist
/// @throws std::invalid_argument as motion_of() does
/// @throws std::runtime_error as StagedFolder does
void save_vtk(const CheckedScenario& scenario, const Table& history, const std::filesystem::path& target);

}  // namespace monograin
