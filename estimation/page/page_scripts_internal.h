// The scripts of a page, which the build takes into the program: see page_scripts.cpp.in.
#pragma once

namespace astrolith {

const char* three_script();           // three.js (MIT licence)
const char* trackball_script();       // its TrackballControls
const char* surface_viewer_script();  // surface_viewer.js

}  // namespace astrolith
