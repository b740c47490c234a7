"""The model: frozen data, validated when made, without any algorithm of planning."""
