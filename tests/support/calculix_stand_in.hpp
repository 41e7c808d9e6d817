/// A program in the place of CalculiX.
#pragma once

namespace monograin {

/// Shell script whose walls bear forces of 3 and 2 of CalculiX's units at every instant, on a surface that does not
/// move.
inline constexpr const char* k_constant_forces = R"sh([ "$1" = -v ] && echo "This is Version 2.20" && exit
steps=$(grep -c '^[*]STEP' continuum.inp)
for i in $(seq "$steps"); do
  printf ' displacements (vx,vy,vz) for set SURFACE and time\n\n'
  printf ' total force (fx,fy,fz) for set WALL0 and time\n\n 0. 0. -3.\n'
  printf ' total force (fx,fy,fz) for set WALL1 and time\n\n -2. 0. 0.\n'
done > continuum.dat
)sh";

}  // namespace monograin
