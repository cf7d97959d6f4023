# cmake --install writes the programs' man pages, which help2man makes from what --help and --version print. Without
# help2man nothing is written.
find_program(ASTROLITH_HELP2MAN help2man)
mark_as_advanced(ASTROLITH_HELP2MAN)
if(NOT ASTROLITH_HELP2MAN)
  return()
endif()

# The line of each program in the index of man pages.
set(about_synth "turn a recipe into a mesh or a texture")
set(about_fit_gabor "fit a layer of Gabor noise to a photo of rock")
set(about_fit_shape "fit metaballs and noise to a shape model")
set(about_describe "compute the histogram that describes a shape")
set(about_compare "measure how alike two shapes are")
set(about_gravity "compute potential, slope and elevation of a body")
set(about_render "draw a sunlit picture of a mesh")
set(about_check_tiles "say whether the tiles of a body join to one closed mesh")
set(about_classify "train and use a classifier of shapes")

get_property(programs GLOBAL PROPERTY ASTROLITH_PROGRAMS)
set(man_folder ${CMAKE_CURRENT_BINARY_DIR}/man)
foreach(program IN LISTS programs)
  install(CODE "
    file(MAKE_DIRECTORY \"${man_folder}\")
    execute_process(
      COMMAND \"${ASTROLITH_HELP2MAN}\" --no-info --section=1 \"--name=${about_${program}}\"
        --source=Astrolith --manual=Astrolith \"--output=${man_folder}/${program}.1\" \"$<TARGET_FILE:${program}>\"
      COMMAND_ERROR_IS_FATAL ANY)" COMPONENT programs)
  install(FILES ${man_folder}/${program}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT programs)
endforeach()
