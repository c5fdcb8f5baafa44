# Packages for Debian, written by cpack: the program with what comes with it, the libraries with their headers, the
# documents. What the program links follows from its libraries; whoever compiles against flinch needs what it needs.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documents)
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documents)

file(STRINGS ${PROJECT_SOURCE_DIR}/cmake/debian-packages.txt packages
     REGEX "^(lib.*-dev|cyclonedds-dev|zlib1g-dev|nlohmann-json3-dev)$")
list(JOIN packages ", " packages)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME flinch)
set(CPACK_PACKAGE_VENDOR flinch)
set(CPACK_PACKAGE_CONTACT "flinch <flinch@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program development documents)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME flinch)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libflinch-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${packages}")
set(CPACK_DEBIAN_DOCUMENTS_PACKAGE_NAME flinch-doc)
set(CPACK_DEBIAN_DOCUMENTS_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTS_PACKAGE_ARCHITECTURE all)
include(CPack)
