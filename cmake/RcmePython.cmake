# The interpreter that the package is for: -DPython_EXECUTABLE=..., or the one that the scripts take (scripts/find-python), and
# pybind11 where it is there. Not in RcmeDependencies.cmake: no program built with an installed rcme needs them.
if(NOT Python_EXECUTABLE)
  execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/find-python OUTPUT_VARIABLE found OUTPUT_STRIP_TRAILING_WHITESPACE
                  ERROR_QUIET)
  set(Python_EXECUTABLE "${found}" CACHE FILEPATH "The Python that the package is built for")
endif()
find_package(Python COMPONENTS Interpreter Development.Module)
if(Python_FOUND)
  set(PYBIND11_FINDPYTHON ON)
  find_package(pybind11 2.10 CONFIG QUIET)
endif()
if(NOT TARGET pybind11::module)
  message(STATUS "pybind11 or Python's headers not found: the Python package is left out")
endif()
