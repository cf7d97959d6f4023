// The synthesiser behind one C interface, for hosts without files and threads: a web page, or node. One body
// at a time: the results of a call last until the next call that makes such a result. Texts are UTF-8. A call
// that fails leaves its reason in astrolith_message(), in the words of synth.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

// The host's: called with the fraction that is done, 0 to 1. Returns 0 to stop the work, which then fails.
int astrolith_host_goes_on(double fraction);

// Makes the mesh of a recipe (JSON or compact) with so many cells along its longest side. `name` is the name
// of the recipe's file in messages. Returns 0 when it is done, 1 when the work failed, 2 when the recipe is
// wrong: the exit status of synth. A body that is meshed again with other cells takes little more than its
// mesh.
int astrolith_make(const char* recipe, std::size_t bytes, const char* name, int resolution);

// One line; empty after a success.
const char* astrolith_message(void);

// The figures of the mesh or the draw as JSON, with the names that synth's --summary has.
const char* astrolith_figures(void);

// The vertices as they are written into files: positions (#V x 3, the recipe's unit), unit normals (#V x 3),
// sRGB bytes (#V x 3, or null), and the triangles (#F x 3).
const float* astrolith_positions(void);
const float* astrolith_normals(void);
const std::uint8_t* astrolith_colors(void);
const std::uint32_t* astrolith_triangles(void);
std::size_t astrolith_vertex_count(void);
std::size_t astrolith_triangle_count(void);

// Finds a number at each vertex of the mesh: its "slope", "height", "albedo" or "label" (surface_values.h).
// The figures are then its unit and, of labels, their words. Returns a status, as astrolith_make() does.
int astrolith_find_values(const char* what);
const float* astrolith_values(void);

// The mesh as the bytes of a file: "ply", "glb", "obj" or "stl". Returns a status, as astrolith_make() does.
int astrolith_write_mesh(const char* format);
// The recipe written anew: "json" with every field, or "astro". Returns a status, as astrolith_make() does.
int astrolith_write_recipe(const char* recipe, std::size_t bytes, const char* name, const char* format);

// Forgets the images that were given, and the body that was made of them.
void astrolith_forget_images(void);
// Gives an image that recipes name, from now on: the name and the bytes of its file, and its grey values or
// the luma of its colours (height x width, full scale is 65535), with its colours (#pixels x 3) or null.
// Returns a status, as astrolith_make() does. The heights of a relief whose image was given are written into
// the recipe.
int astrolith_give_image(const char* name, const char* bytes, std::size_t count, int width, int height,
                         const std::uint16_t* values, const std::uint16_t* rgb);

// Draws a body from the population of a recipe, under its conditions and by its seed. The figures are then
// those of the draw: its diameter, its class, and the file of the recipe whose ground lies on it, or "". The
// drawn recipe is written as JSON, without that ground. Returns a status, as astrolith_make() does.
int astrolith_draw(const char* recipe, std::size_t bytes, const char* name);
// Lays the ground on the body that was drawn last: `recipe` is the recipe that its figures name. The drawn
// recipe is written as JSON. Returns a status, as astrolith_make() does.
int astrolith_lay_ground(const char* recipe, std::size_t bytes, const char* name);

// The bytes that were written last, and their SHA-256.
const char* astrolith_bytes(void);
std::size_t astrolith_byte_count(void);
const char* astrolith_sha256(void);

// The release and the commit of the code.
const char* astrolith_version(void);
}
