# Adds up the test cases of all runs in ctest's log. A script counts as one test case, and so does a run that failed
# without naming a case (it crashed, or took too long).
/^[0-9]+\/[0-9]+ Test(ing)?: / { summary = failed_here = 0 }
/^\[doctest\] test cases:/ {
  split($0, part, "|")
  summary = 1
  passed += part[2]
  failed += failed_here = part[3] + 0
}
/^Test Passed/ && !summary { passed++ }
/^Test Failed/ && !failed_here { failed++ }
END { printf "%d passed, %d failed\n", passed, failed }
