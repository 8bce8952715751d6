message(FATAL_ERROR
  "npm could not install what bundles the page of `twinbench report` (into ${FOLDER}); without network configure with "
  "-DTWINBENCH_REPORT=OFF")
