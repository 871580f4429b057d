# outrider_http: Debian's compiled cpp-httplib. The layout of its classes depends on these macros (cpp-httplib.pc).
find_path(HTTPLIB_INCLUDE_DIR httplib.h REQUIRED)
find_library(HTTPLIB_LIBRARY cpp-httplib REQUIRED)
add_library(outrider_http INTERFACE)
target_include_directories(outrider_http SYSTEM INTERFACE "${HTTPLIB_INCLUDE_DIR}")
target_compile_definitions(outrider_http INTERFACE CPPHTTPLIB_OPENSSL_SUPPORT CPPHTTPLIB_ZLIB_SUPPORT CPPHTTPLIB_BROTLI_SUPPORT)
target_link_libraries(outrider_http INTERFACE "${HTTPLIB_LIBRARY}" Threads::Threads)
