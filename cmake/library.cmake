# libgranrad: every room in one shared library, for programs of others and for Python. The rooms themselves are static
# libraries, which our programs link.
set(granrad_rooms granrad_base granrad_ranks granrad_files granrad_toml granrad_page granrad_bed granrad_cover granrad_io granrad_mesh granrad_scene granrad_packing granrad_feed granrad_engine
    granrad_native granrad_liggghts granrad_replay)
foreach(folder raytrace fit coupling)
  get_property(found DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} PROPERTY BUILDSYSTEM_TARGETS)
  list(APPEND granrad_rooms ${found})
  get_property(below DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} PROPERTY SUBDIRECTORIES)
  foreach(sub ${below})
    get_property(found DIRECTORY ${sub} PROPERTY BUILDSYSTEM_TARGETS)
    list(APPEND granrad_rooms ${found})
  endforeach()
endforeach()
set(granrad_static_rooms)
foreach(room ${granrad_rooms})
  if(TARGET ${room})
    get_target_property(kind ${room} TYPE)
    if(kind STREQUAL STATIC_LIBRARY OR kind STREQUAL OBJECT_LIBRARY)  # kernels of one instruction set
      list(APPEND granrad_static_rooms ${room})
    endif()
  endif()
endforeach()
list(REMOVE_DUPLICATES granrad_static_rooms)
set(granrad_objects)
foreach(room ${granrad_static_rooms})
  list(APPEND granrad_objects $<TARGET_OBJECTS:${room}>)
endforeach()
add_library(granrad SHARED ${granrad_objects})
add_library(granrad::granrad ALIAS granrad)
target_link_libraries(granrad PRIVATE granrad_flags fmt::fmt hdf5::hdf5 ${UDUNITS2_LIBRARY} PNG::PNG pugixml::pugixml ZLIB::ZLIB ${ZIP_LIBRARY} embree Eigen3::Eigen Ceres::ceres
  ${MUPARSER_LIBRARY} ${CMAKE_DL_LIBS})
target_include_directories(granrad INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/granrad>)
target_link_options(granrad PRIVATE -Wl,--no-undefined)  # a room with a library that is not named here
target_compile_features(granrad INTERFACE cxx_std_20)
set_target_properties(granrad PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
