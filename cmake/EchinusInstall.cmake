# installed and exported targets
