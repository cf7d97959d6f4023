// Lists of points: see read_points() of mesh_io.h.
#pragma once

#include "geometry/io/mesh_io.h"
