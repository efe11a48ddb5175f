# Read by ctest after the tests that it discovers in the programs: about how many seconds each of the long ones takes,
# so that `ctest -j` starts them first even where nothing was measured yet. The long ones of CMakeLists.txt have their
# COST there. The name of a test that was left out is skipped.
set_tests_properties(experiments.PlantedFaults.AreCaughtAndTheirSoundTwinsAreNot PROPERTIES COST 25)
set_tests_properties(end_to_end.Audit.InShardsGivesTheSameBytes PROPERTIES COST 28)
set_tests_properties(end_to_end.Shards.KilledLostAndMadeAgainGiveTheBytesOfOneRun PROPERTIES COST 20)
set_tests_properties(peers.PeerCalls.EndInAStatusWhateverComesIn PROPERTIES COST 20)
