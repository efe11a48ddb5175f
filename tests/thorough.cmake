# Read by ctest: the suites of the label "thorough" (CMakeLists.txt).
set_tests_properties(end_to_end.Parts PROPERTIES LABELS thorough)
set_tests_properties(end_to_end.SurfaceProgram PROPERTIES LABELS thorough)
set_tests_properties(end_to_end.PaperTableProgram PROPERTIES LABELS thorough)
set_tests_properties(peers.PeerContract PROPERTIES LABELS thorough)
set_tests_properties(end_to_end.Report PROPERTIES LABELS thorough)
set_tests_properties(end_to_end.Audit PROPERTIES LABELS thorough)
