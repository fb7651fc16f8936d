# The definitions below include/palpate (files .ipp) that neither palpate::compiled nor source.hpp contains. Adapters of
# SDKs must be included after the header of the SDK, in the program that uses it. Readers with other libraries are
# palpate::xml_meshes; the C interface is a library of its own (c_interface.cmake).
set(palpate_not_compiled "^device/(openhaptics|force_dimension|chai3d)\\.|^io/xml/|^c/")
