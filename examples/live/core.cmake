# live_core: scenes, organs, devices and loops of examples/live, without a window. Used by the program and by the tests.
if(TARGET live_core)
  return()
endif()
file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/core/*.cpp ${CMAKE_CURRENT_LIST_DIR}/organs/*.cpp
     ${CMAKE_CURRENT_LIST_DIR}/scenes/*.cpp)
add_library(live_core STATIC EXCLUDE_FROM_ALL ${sources})
# Most time is spent on the headers: the small files are compiled together, each composition beside them.
set_target_properties(live_core PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 10
                                           OPTIMIZE_DEPENDENCIES ON)  # make compiles it beside palpate::compiled
file(GLOB organs ${CMAKE_CURRENT_LIST_DIR}/organs/*.cpp)
set_source_files_properties(${organs} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
target_include_directories(live_core INTERFACE ${CMAKE_CURRENT_LIST_DIR})
target_link_libraries(live_core PUBLIC palpate_own)
target_compile_definitions(live_core PUBLIC PALPATE_EXAMPLE_DATA="${PROJECT_SOURCE_DIR}/examples/data")
