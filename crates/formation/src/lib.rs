//! The control core: graph, relative geometry, laws, observer.
