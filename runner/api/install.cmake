# What programs that use the library need: headers, a CMake package and a file for pkg-config. Only the headers that
# runner/api/terrazzo.h includes are public; they are installed in a folder of their own, and include each other there.
include(CMakePackageConfigHelpers)

install(TARGETS terrazzo EXPORT terrazzoTargets LIBRARY DESTINATION lib)
install(EXPORT terrazzoTargets NAMESPACE terrazzo:: DESTINATION lib/cmake/terrazzo)

file(WRITE ${CMAKE_BINARY_DIR}/terrazzoConfig.cmake "include(\${CMAKE_CURRENT_LIST_DIR}/terrazzoTargets.cmake)
")
# Before 1.0 a new minor version may change the interface.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/terrazzoConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/terrazzoConfig.cmake ${CMAKE_BINARY_DIR}/terrazzoConfigVersion.cmake
        DESTINATION lib/cmake/terrazzo)

file(WRITE ${CMAKE_BINARY_DIR}/terrazzo.pc "prefix=\${pcfiledir}/../..
Name: terrazzo
Description: more material from a small one
Version: ${PROJECT_VERSION}
Libs: -L\${prefix}/lib -lterrazzo
Cflags: -I\${prefix}/include -std=c++20
")
install(FILES ${CMAKE_BINARY_DIR}/terrazzo.pc DESTINATION lib/pkgconfig)

install(CODE "set(terrazzo_source ${CMAKE_SOURCE_DIR})")
install(SCRIPT ${CMAKE_CURRENT_LIST_DIR}/install_headers.cmake)
