# A stand-in for PoseLib: its names, and no estimator behind them.
set(PoseLib_VERSION 2.0.5)
add_library(PoseLib::PoseLib INTERFACE IMPORTED)
target_include_directories(PoseLib::PoseLib INTERFACE "${CMAKE_CURRENT_LIST_DIR}")
