# Read by ctest: the suites of the label "thorough" (CMakeLists.txt).
set_tests_properties(
  end_to_end.Parts
  end_to_end.SurfaceProgram
  end_to_end.PaperTableProgram
  end_to_end.TuneProgram
  end_to_end.TwinProgram
  peers.PeerContract
  end_to_end.Report
  end_to_end.Audit
  peers.PeerCalls
  experiments.EstimatorContract
  experiments.PlantedFaults
  experiments.TwinReport
  fuzz.DamagedParts
  fuzz.CorruptedResultFile
  fuzz.MatchFileBomb
  end_to_end.Show
  end_to_end.Shards
  PROPERTIES LABELS thorough)
