namespace granrad {}
