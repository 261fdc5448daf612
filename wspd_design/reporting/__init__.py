"""Reports: a block model and its renderings as HTML and PDF; nothing is computed here."""
