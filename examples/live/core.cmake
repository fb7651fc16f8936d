# live_core: scenes, organs, devices and loops of examples/live, without a window. Used by the program and by the tests.
if(TARGET live_core)
  return()
endif()
file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/core/*.cpp ${CMAKE_CURRENT_LIST_DIR}/organs/*.cpp
     ${CMAKE_CURRENT_LIST_DIR}/scenes/*.cpp)
add_library(live_core STATIC EXCLUDE_FROM_ALL ${sources})
target_include_directories(live_core INTERFACE ${CMAKE_CURRENT_LIST_DIR})
target_link_libraries(live_core PUBLIC palpate_own)
target_compile_definitions(live_core PUBLIC PALPATE_EXAMPLE_DATA="${PROJECT_SOURCE_DIR}/examples/data")
