# The web build: the folders that the core of the page needs, compiled to WebAssembly.
include(AstrolithWebPackages)
add_compile_options(-fwasm-exceptions -msimd128)
add_link_options(-fwasm-exceptions)
foreach(folder numerics recipe geometry gravity synthesis web/core web/page)
  add_subdirectory(${folder})
endforeach()
