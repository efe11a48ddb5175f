# Warnings of our own code, which stop the build unless RCME_WARNINGS_AS_ERRORS is off.
add_library(rcme_warnings INTERFACE)
target_compile_options(rcme_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow
                                               $<$<BOOL:${RCME_WARNINGS_AS_ERRORS}>:-Werror>)

# rcme_add_room(NAME LINKS ... [PRIVATE_LINKS ...] [SOURCES ...] [APART ...] [PRECOMPILED ... | PRECOMPILED_BY NAME]
# [TOGETHER ...]): one library per room, of all sources in its folder, or of those SOURCES of it, but those of APART; headers
# included from the repository root. Fused multiply-add is off everywhere: results must not depend on the compiler's choice.
#
# Most of a build goes into reading the same headers again. PRECOMPILED: headers of libraries that much of the room includes,
# compiled once beside those of the language; PRECOMPILED_BY takes those of another target. TOGETHER: folders whose sources are
# compiled several at a time, so that names in their anonymous namespaces differ, and in those of all small folders. A source
# includes what it uses all the same: where CMAKE_DISABLE_PRECOMPILE_HEADERS is on, as in the preset `dev`, each is compiled by
# itself.
function(rcme_add_room name)
  cmake_parse_arguments(ROOM "" "PRECOMPILED_BY" "LINKS;PRIVATE_LINKS;SOURCES;APART;PRECOMPILED;TOGETHER" ${ARGN})
  set(sources ${ROOM_SOURCES})
  if(NOT sources)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cc)
  endif()
  list(REMOVE_ITEM sources ${ROOM_APART})
  add_library(rcme_${name} STATIC ${sources})
  add_library(rcme::${name} ALIAS rcme_${name})
  set_target_properties(rcme_${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(rcme_${name} PUBLIC cxx_std_20)
  target_compile_options(rcme_${name} PUBLIC -ffp-contract=off)
  # For the module of Python; our own functions are inlined and called as in a program.
  set_target_properties(rcme_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_options(rcme_${name} PRIVATE -fno-semantic-interposition)
  target_include_directories(rcme_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/rcme>)
  target_link_libraries(rcme_${name} PUBLIC ${ROOM_LINKS}
                        PRIVATE ${ROOM_PRIVATE_LINKS} $<BUILD_INTERFACE:rcme_warnings>)
  if(ROOM_PRECOMPILED)
    target_precompile_headers(rcme_${name} PRIVATE <algorithm> <cmath> <functional> <map> <memory> <string> <vector>
                                                   ${ROOM_PRECOMPILED})
  elseif(ROOM_PRECOMPILED_BY)
    target_precompile_headers(rcme_${name} REUSE_FROM rcme_${ROOM_PRECOMPILED_BY})
  endif()
  if(ROOM_TOGETHER)
    rcme_compile_together(rcme_${name} 16 ${ROOM_TOGETHER})
  endif()
  install(TARGETS rcme_${name} EXPORT rcmeTargets)
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rcme
          FILES_MATCHING PATTERN "*.h")
endfunction()

# rcme_compile_together(TARGET SIZE FOLDER ...): the target's sources in each folder and its subfolders ("." is without
# subfolders) are compiled SIZE at a time; folders with fewer than half as many share their groups.
function(rcme_compile_together target size)
  if(CMAKE_DISABLE_PRECOMPILE_HEADERS)
    return()
  endif()
  set(of_small_folders)
  foreach(folder ${ARGN})
    if(folder MATCHES "(^|/)[.]$")
      file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cc)
    else()
      file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cc)
    endif()
    list(LENGTH sources number)
    math(EXPR doubled "2 * ${number}")
    if(doubled LESS size)
      list(APPEND of_small_folders ${sources})
    else()
      rcme_name_groups(${size} ${folder} ${sources})
    endif()
  endforeach()
  rcme_name_groups(${size} small_folders ${of_small_folders})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()

# rcme_name_groups(SIZE NAME SOURCE ...): NAME/0 is the group of the first SIZE sources, and so on. Up to a third of SIZE that
# are left belong to the last group: one of their own would read the same headers again.
function(rcme_name_groups size name)
  set(number 0)
  list(LENGTH ARGN sources)
  math(EXPR last "(3 * ${sources} - ${size} - 1) / (3 * ${size})")
  foreach(source ${ARGN})
    math(EXPR group "${number} / ${size}")
    if(group GREATER last)
      set(group ${last})
    endif()
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${name}/${group})
    math(EXPR number "${number} + 1")
  endforeach()
endfunction()

# rcme_uses_simd(ROOM): the room has kernels in Highway, compiled for three instruction sets and chosen at run time: plain
# scalar code, AVX2 with fused multiply-add, AVX-512.
function(rcme_uses_simd name)
  target_link_libraries(rcme_${name} PRIVATE hwy::hwy)
  target_compile_definitions(rcme_${name} PRIVATE
    "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3_DL|HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV)")
endfunction()
