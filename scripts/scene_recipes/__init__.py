"""One function per scene: it returns the document and what its image must show."""
