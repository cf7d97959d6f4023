#!/usr/bin/env bash
# The arrows between folders, and between the rooms inside them: a file may include files of its own room and of the
# rooms that its row names. A name stands for the folder and all its rooms; "geometry/." is the folder without its rooms.
set -euo pipefail
cd "$(dirname "$0")/.."

git grep -noE '#include "[a-z_]+/[^"]*"' -- '*.h' '*.cpp' '*.cu' ':!tests' | awk -F: -v rows='
numerics                   -> numerics/.
numerics/files             -> numerics
numerics/version           -> numerics
recipe                     -> numerics recipe/compact
recipe/compact             -> numerics
geometry                   -> numerics geometry/.
geometry/atlas             -> numerics geometry/.
geometry/io                -> numerics geometry/. geometry/atlas
geometry/points            -> numerics
geometry/surface           -> numerics geometry/. geometry/points
gravity                    -> numerics geometry
descriptor                 -> numerics geometry
descriptor/surface         -> numerics geometry gravity descriptor
descriptor/features        -> numerics geometry descriptor/surface
descriptor/spectrum        -> numerics geometry
descriptor/classification  -> numerics geometry descriptor
synthesis/noise            -> numerics recipe
synthesis/mesh             -> numerics geometry
synthesis/picture          -> numerics geometry
synthesis/body             -> numerics recipe synthesis/noise synthesis/mesh
synthesis/spots            -> numerics recipe synthesis/noise synthesis/body
synthesis/gabor            -> numerics recipe synthesis/noise synthesis/body
synthesis/exemplar         -> numerics recipe synthesis/noise synthesis/body synthesis/gabor
synthesis/landforms        -> numerics recipe geometry gravity synthesis/noise synthesis/mesh synthesis/body
synthesis/relief           -> numerics recipe synthesis/noise synthesis/body synthesis/exemplar
synthesis/field            -> numerics recipe geometry synthesis/noise synthesis/mesh synthesis/body synthesis/spots synthesis/gabor synthesis/exemplar synthesis/landforms synthesis/relief
synthesis/finish           -> numerics recipe geometry synthesis
synthesis/bake             -> numerics recipe geometry synthesis/mesh synthesis/picture synthesis/field
cuda                       -> numerics descriptor synthesis cuda/.
cuda/mesher                -> numerics synthesis cuda/.
estimation/optimize        -> numerics
estimation/page            -> numerics geometry synthesis/picture
estimation/gabor           -> numerics recipe geometry synthesis/gabor synthesis/picture estimation/page estimation/gabor
estimation/gabor/image     -> numerics synthesis/picture
estimation/gabor/spectrum  -> numerics estimation/gabor/image
estimation/gabor/exemplar  -> numerics recipe synthesis/exemplar estimation/gabor/image estimation/gabor/spectrum
estimation/gabor/pursuit   -> numerics recipe estimation/gabor/spectrum
estimation/gabor/lobes     -> numerics recipe estimation/gabor/spectrum estimation/gabor/pursuit
estimation/shape/target    -> numerics recipe geometry synthesis
estimation/shape/packing   -> numerics recipe geometry
estimation/shape/model     -> numerics recipe geometry synthesis
estimation/shape/refinement -> numerics recipe geometry estimation/shape/target estimation/shape/model
estimation/shape/fit       -> numerics recipe geometry descriptor synthesis estimation/optimize estimation/shape/target estimation/shape/packing estimation/shape/model estimation/shape/refinement
estimation/shape/details   -> numerics recipe geometry descriptor synthesis cuda estimation/optimize estimation/gabor estimation/shape/target estimation/shape/model estimation/shape/fit
estimation/shape/relief    -> numerics recipe geometry synthesis
estimation/shape/report    -> numerics geometry descriptor/surface synthesis/picture estimation/page estimation/shape/target estimation/shape/fit
tasks/job                  -> numerics recipe geometry synthesis cuda
tasks/repair               -> numerics geometry tasks/job
tasks/gravity              -> numerics recipe geometry gravity synthesis tasks/job tasks/repair
tasks/description          -> numerics recipe geometry gravity descriptor synthesis cuda tasks/job tasks/repair
tasks/synth                -> numerics recipe geometry gravity synthesis cuda tasks/job tasks/gravity tasks/description
tasks/estimation           -> numerics recipe geometry gravity descriptor synthesis cuda estimation tasks
apps                       -> numerics recipe geometry gravity descriptor synthesis cuda estimation tasks apps
web/core                   -> numerics recipe geometry gravity synthesis tasks/synth
python                     -> numerics recipe geometry gravity descriptor synthesis cuda estimation tasks python
' '
  function folder_of(path) { sub(/\/[^\/]*$/, "", path); return path }
  function row_of(folder) {
    while (!(folder in allowed) && sub(/\/[^\/]*$/, "", folder)) {}
    return folder
  }
  BEGIN {
    n = split(rows, lines, "\n")
    for (i = 1; i <= n; ++i)
      if (split(lines[i], sides, " *-> *") == 2) allowed[sides[1]] = " " sides[2] " "
  }
  function may(room, to,    i, names, count) {
    if (to == room) return 1
    count = split(allowed[room], names, " ")
    for (i = 1; i <= count; ++i)
      if (to == names[i] || to "/." == names[i] || (names[i] !~ /\.$/ && index(to "/", names[i] "/") == 1)) return 1
    return 0
  }
  {
    room = row_of(folder_of($1))
    to = $3
    gsub(/#include "|"/, "", to)
    if (room in allowed && !may(room, folder_of(to))) {
      print "Against the arrows: " $1 ":" $2 " in " room "/ includes " to
      status = 1
    }
  }
  END { exit status }'
