# Before the Debian package is built: what Debian's policy asks for beyond what `cmake --install` gives.
set(share ${CPACK_TEMPORARY_DIRECTORY}/usr/share)
set(doc ${share}/doc/terrazzo)
file(WRITE ${doc}/copyright "terrazzo
Copyright: the terrazzo developers
License: Apache-2.0
 Its text is in /usr/share/common-licenses/Apache-2.0 on Debian systems.
")
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${doc}/changelog "terrazzo (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * Built from its sources.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
file(GLOB pages ${share}/man/man1/*.1)
execute_process(COMMAND gzip -9nf ${pages} ${doc}/changelog COMMAND_ERROR_IS_FATAL ANY)
