# The served twin through libiio.
if(Iio_FOUND)
  add_executable(bench_bridge bridge_bench.cc)
  target_link_libraries(bench_bridge PRIVATE twinbench_rotary_4dof_twin twinbench_hw_serve PkgConfig::Iio)
endif()
