# Read by ctest: the suites of the label "thorough" (CMakeLists.txt).
set_tests_properties(
  end_to_end.Parts
  end_to_end.SurfaceProgram
  end_to_end.PaperTableProgram
  peers.PeerContract
  end_to_end.Report
  end_to_end.Audit
  peers.PeerCalls
  experiments.EstimatorContract
  experiments.TwinReport
  fuzz.DamagedParts
  fuzz.CorruptedResultFile
  end_to_end.Show
  end_to_end.Shards
  PROPERTIES LABELS thorough)
