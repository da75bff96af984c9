"""The values that flow through murkscan: frozen, without files and without settings."""
